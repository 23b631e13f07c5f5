// Runs a tree in an installed BehaviorTree.CPP, with leaves that do what a scenario gives, and tells what happened.
//
// It reads one job from standard input and writes one answer to standard output, both JSON; replay.py says what is in
// them.  The answer begins with the record separator of RFC 7464, because the engine prints warnings there, too.
#include "clock.hpp"

#include <behaviortree_cpp/bt_factory.h>
#include <behaviortree_cpp/contrib/json.hpp>

#include <unistd.h>

#include <iostream>
#include <map>
#include <mutex>
#include <set>

using Json = nlohmann::json;
using BT::NodeStatus;

namespace
{
constexpr int64_t PERIOD = 10;  // milliseconds between two ticks

// What a skill writes of which nothing says what it is: its number.
struct Unsaid
{
  size_t number;
};

template <typename Store>
void stored(const Json& value, Store&& store)
{
  if(value.is_string())
    store(value.get<std::string>());
  else if(value.is_boolean())
    store(value.get<bool>());
  else if(value.is_number_float())
    store(value.get<double>());
  else
    store(value.get<int64_t>());
}

Json asJson(const BT::Any& value)
{
  if(value.empty())
    return nullptr;
  if(value.isType<Unsaid>())
    return { { "unsaid", const_cast<BT::Any&>(value).castPtr<Unsaid>()->number } };
  if(value.isString())
    return value.cast<std::string>();
  if(value.type() == typeid(double) || value.type() == typeid(float))
    return value.cast<double>();
  if(value.isNumber())
    return value.cast<int64_t>();
  return BT::demangle(value.type());
}

// Gives an entry a value, and no type if it has none, as a program does whose entry has the type that the tree needs.
void give(BT::Blackboard& board, const std::string& key, const Json& value)
{
  auto entry = board.getEntry(key);
  if(entry && entry->info.isStronglyTyped())
  {
    stored(value, [&](const auto& typed) { board.set(key, typed); });
    return;
  }
  if(!entry)
  {
    board.createEntry(key, BT::TypeInfo());
    entry = board.getEntry(key);
  }
  stored(value, [&](const auto& typed) { entry->value = BT::Any(typed); });
  entry->sequence_id++;
}

class Run
{
public:
  explicit Run(const Json& job) : job_(job)
  {
    for(const Json& change : job.at("at_changes"))
      at_changes_[{ change.at("now"), change.at("changes") }] = change.at("sets");
    for(const auto& uid : job.at("watched"))
      watched_.insert(uid.get<unsigned>());
  }

  Json answer()
  {
    Json answer = { { "end", "is refused" }, { "error", "" } };
    try
    {
      create();
      answer["end"] = "throws";
      answer["end"] = ended();
    }
    catch(const std::exception& error)
    {
      answer["error"] = error.what();
    }
    close();
    answer["moments"] = moments_;
    return answer;
  }

  NodeStatus tickLeaf(const BT::TreeNode& node)
  {
    if(node.status() != NodeStatus::RUNNING)
      begin(node);
    Leaf& leaf = leaves_[node.UID()];
    const Json& ticks = job_.at("leaves").value(std::to_string(node.UID()), Json::array());
    if(leaf.next == ticks.size() || ticks[leaf.next].at("now") > virtual_clock::now())
      return leaf.last;  // nothing has changed
    const Json& tick = ticks[leaf.next++];
    giveAll(tick.at("sets"));
    for(const Json& write : tick.at("writes"))
      writeEntry(*node.config().blackboard, write.at("key"), write.at("value"));
    return leaf.last = BT::convertFromString<NodeStatus>(tick.at("result").get<std::string>());
  }

private:
  struct Leaf
  {
    size_t next = 0;
    NodeStatus last = NodeStatus::RUNNING;
  };

  void create();
  std::string ended();
  bool isOver();
  bool isPast(const Json& moment) const;
  void letSettle();
  void pass();
  bool isAwake();
  void changed(const BT::TreeNode& node, NodeStatus before, NodeStatus after);

  // ---- what happens ----

  // What happens from now on is in a tick, or not.
  void look(bool is_tick)
  {
    if(is_tick == is_tick_ && virtual_clock::now() == now_)
      return;
    close();
    if(virtual_clock::now() != now_)
      changes_ = 0;
    is_tick_ = is_tick;
    now_ = virtual_clock::now();
  }

  // Takes what has happened for a moment of its own, unless it repeats that of the tick before.
  void close()
  {
    if(events_.empty())
      return;
    Json* const last = moments_.empty() ? nullptr : &moments_.back();
    if(last && is_tick_ && last->at(2) && last->at(1) == now_ - PERIOD && last->at(3) == events_)
      last->at(1) = now_;
    else
      moments_.push_back({ now_, now_, is_tick_, events_ });
    events_ = Json::array();
  }

  void note(Json event)
  {
    look(is_tick_);
    events_.push_back(std::move(event));
  }

  void begin(const BT::TreeNode& node)
  {
    if(!open_.insert(node.UID()).second)
      return;
    if(watched_.count(node.UID()) == 0)
      return;
    Json values = Json::object();
    for(const auto& ports : { node.config().input_ports, node.config().output_ports })
    {
      for(const auto& [port, written] : ports)
      {
        if(port[0] != '_')  // up to 4.6 it has other attributes of a SubTree, too
          values[port] = valueAt(node, port, written);
      }
    }
    if(!values.empty())
      note({ node.UID(), values });
  }

  static Json valueAt(const BT::TreeNode& node, const std::string& port, const std::string& written)
  {
    const auto key = BT::TreeNode::getRemappedKey(port, written);
    if(!key)
      return written;
    const auto entry = node.config().blackboard->getEntry(std::string(*key));
    return entry ? asJson(entry->value) : nullptr;
  }

  void giveAll(const Json& sets)
  {
    for(const Json& set : sets)
      give(*board_, set.at("key"), set.at("value"));
  }

  static void writeEntry(BT::Blackboard& board, const std::string& key, const Json& value)
  {
    if(!value.is_object())
    {
      stored(value, [&](const auto& typed) { board.set(key, typed); });
      return;
    }
    auto entry = board.getEntry(key);
    if(!entry)
    {
      board.createEntry(key, BT::TypeInfo());
      entry = board.getEntry(key);
    }
    entry->value = BT::Any(Unsaid{ value.at("unsaid") });
    entry->sequence_id++;
  }

  void sample()
  {
    for(const Json& key : job_.at("read"))
    {
      const auto entry = board_->getEntry(key.get<std::string>());
      Json value = entry ? asJson(entry->value) : nullptr;
      if(value.is_object())
        value = Json::object();
      Json& last = sampled_[key];
      if(value == last || value.is_null())
        continue;
      last = value;
      note({ key, value });
    }
  }

  const Json& job_;
  std::map<std::pair<int64_t, size_t>, Json> at_changes_;
  std::set<unsigned> watched_;
  std::map<std::string, Json> sampled_;
  std::map<unsigned, Leaf> leaves_;
  std::set<unsigned> open_;
  bool may_have_timer_ = false;
  std::mutex one_at_a_time_;  // a Timeout halts its child from another thread
  size_t between_ = 0;
  size_t changes_ = 0;  // of a status, at the time of the last event
  bool is_tick_ = false;
  int64_t now_ = 0;
  Json events_ = Json::array();
  Json moments_ = Json::array();  // first and last time, whether it is a tick, events
  BT::BehaviorTreeFactory factory_;
  BT::Blackboard::Ptr board_ = BT::Blackboard::create();
  BT::Tree tree_;
  std::vector<BT::TreeNode::StatusChangeSubscriber> subscribers_;
};

struct Action : BT::StatefulActionNode
{
  Action(const std::string& name, const BT::NodeConfig& config, Run& run) : StatefulActionNode(name, config), run_(run)
  {}
  NodeStatus onStart() override
  {
    return run_.tickLeaf(*this);
  }
  NodeStatus onRunning() override
  {
    return run_.tickLeaf(*this);
  }
  void onHalted() override
  {}
  Run& run_;
};

struct Condition : BT::ConditionNode
{
  Condition(const std::string& name, const BT::NodeConfig& config, Run& run) : ConditionNode(name, config), run_(run)
  {}
  NodeStatus tick() override
  {
    return run_.tickLeaf(*this);
  }
  Run& run_;
};

void Run::create()
{
  for(const Json& kind : job_.at("kinds"))
  {
    BT::TreeNodeManifest manifest;
    manifest.registration_ID = kind.at("id");
    const bool is_condition = kind.at("is_condition");
    manifest.type = is_condition ? BT::NodeType::CONDITION : BT::NodeType::ACTION;
    for(const Json& port : kind.at("ports"))
      manifest.ports.insert(BT::BidirectionalPort<BT::AnyTypeAllowed>(port.get<std::string>()));
    factory_.registerBuilder(
        manifest, [=](const std::string& name, const BT::NodeConfig& config) -> std::unique_ptr<BT::TreeNode> {
          if(is_condition)
            return std::make_unique<Condition>(name, config, *this);
          return std::make_unique<Action>(name, config, *this);
        });
  }
  if(job_.contains("rules"))
    factory_.loadSubstitutionRuleFromJSON(job_.at("rules"));
  giveAll(job_.at("given"));
  for(const Json& text : job_.at("texts"))
    factory_.registerBehaviorTreeFromText(text);
  tree_ = factory_.createTree(job_.at("tree"), board_);
  tree_.applyVisitor([this](BT::TreeNode* node) {
    subscribers_.push_back(node->subscribeToStatusChange(
        [this](BT::TimePoint, const BT::TreeNode& node, NodeStatus before, NodeStatus after) {
          changed(node, before, after);
        }));
  });
}

void Run::changed(const BT::TreeNode& node, NodeStatus before, NodeStatus after)
{
  const std::lock_guard<std::mutex> lock(one_at_a_time_);
  note({ node.UID(), static_cast<int>(after) });
  changes_++;
  may_have_timer_ |= before == NodeStatus::RUNNING || after == NodeStatus::RUNNING;
  if(before != NodeStatus::RUNNING && after != NodeStatus::IDLE)
    begin(node);
  if(after != NodeStatus::RUNNING)
    open_.erase(node.UID());
  if(const auto sets = at_changes_.find({ virtual_clock::now(), changes_ }); sets != at_changes_.end())
    giveAll(sets->second);
}

// Lets the world change as it did; whether the program ticks no more.
bool Run::isOver()
{
  look(false);
  const Json& between = job_.at("between");
  for(; between_ < between.size(); between_++)
  {
    const Json& next = between[between_];
    if(!isPast(next))
      break;
    giveAll(next.at("sets"));
  }
  sample();
  return isPast(job_.at("until"));
}

// Whether it is later, or so many changes of a status have happened by now.
bool Run::isPast(const Json& moment) const
{
  const int64_t now = virtual_clock::now();
  return now > moment.at("now") || (now == moment.at("now") && changes_ >= moment.at("changes"));
}

std::string Run::ended()
{
  if(!virtual_clock::begin())
    return "no clock";
  sample();
  while(!isOver())
  {
    look(true);
    const NodeStatus result = tree_.tickOnce();
    letSettle();
    if(result != NodeStatus::RUNNING)
    {
      look(false);
      sample();
      return BT::toStr(result);
    }
    if(isOver())
      break;
    pass();
  }
  tree_.haltTree();
  return "RUNNING";
}

// What Tree::sleep does: a node that asks to be ticked ends it.
void Run::pass()
{
  const int64_t end = virtual_clock::now() + PERIOD;
  while(virtual_clock::now() < end)
  {
    virtual_clock::advance(end);
    letSettle();
    if(isAwake())
      return;
  }
}
// Lets timers know that have been set or cancelled; only a node that begins to run or runs no more does that.
void Run::letSettle()
{
  if(may_have_timer_)
    virtual_clock::poke();
  may_have_timer_ = false;
}

// Whether a node has asked to be ticked.  Up to 4.6 the engine does not say why it sleeps no longer.
bool Run::isAwake()
{
  virtual_clock::has_slept = false;
  tree_.sleep(std::chrono::milliseconds(0));
  return !virtual_clock::has_slept;
}
}  // namespace

int main(int argc, char**)
{
  if(argc > 1)
  {
    std::cout << BT::LibraryVersionString() << std::endl;
    return 0;
  }
  const Json job = Json::parse(std::cin);
  alarm(job.at("seconds"));
  // Not taken down: that runs scripts of nodes that are halted, and ends the process if one fails.
  auto& run = *new Run(job);
  std::cout << '\x1e' << run.answer().dump(-1, ' ', false, Json::error_handler_t::replace) << std::endl;
  _exit(0);
}
